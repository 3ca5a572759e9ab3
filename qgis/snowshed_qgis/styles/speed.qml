<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <pipe>
    <rasterrenderer type="singlebandpseudocolor" band="1" opacity="0.85" classificationMin="0" classificationMax="30" alphaBand="-1">
      <rastershader>
        <colorrampshader colorRampType="DISCRETE" classificationMode="1" clip="0" minimumValue="0" maximumValue="30">
          <item value="0.1" color="#ffffff" alpha="0" label=""/>
          <item value="2.0" color="#ffe998" alpha="255" label="0.1 to 2 m/s"/>
          <item value="5.0" color="#fecc68" alpha="255" label="2 to 5 m/s"/>
          <item value="10.0" color="#fea145" alpha="255" label="5 to 10 m/s"/>
          <item value="15.0" color="#fc6631" alpha="255" label="10 to 15 m/s"/>
          <item value="20.0" color="#e92720" alpha="255" label="15 to 20 m/s"/>
          <item value="30.0" color="#c20325" alpha="255" label="20 to 30 m/s"/>
          <item value="inf" color="#800026" alpha="255" label="above 30 m/s"/>
        </colorrampshader>
      </rastershader>
    </rasterrenderer>
  </pipe>
  <blendMode>0</blendMode>
</qgis>
